// Generated from ComputeShaders/mlp_matmul.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const MlpMatmul = {
  ...{"stage":"comp","entry":"MlpMatmul","buffers":[{"name":"weight","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"bias","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"x","binding":2,"read_only":true,"scalar":"float","stride":4},{"name":"y","binding":3,"read_only":false,"scalar":"float","stride":4}],"constants":[{"name":"weight_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"bias_layout","offset":16,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"inputs","offset":28,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"outputs","offset":32,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"relu","offset":36,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":4,"threads":[32,8,1]},
  code: `struct Constants{@align(16)weight_layout_0:vec3u,@align(16)bias_layout_0:vec3u,@align(4)inputs_0:u32,@align(16)outputs_0:u32,@align(4)relu_0:u32,};
@binding(4)@group(0)var<uniform>Constants_0:Constants;
@binding(0)@group(0)var<storage,read>weight_0:array<u32>;
@binding(2)@group(0)var<storage,read>x_0:array<f32>;
@binding(1)@group(0)var<storage,read>bias_0:array<u32>;
@binding(3)@group(0)var<storage,read_write>y_0:array<f32>;
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn byteAt_0(a:u32,b:u32)->i32{return i32(a<<(24u-8u*b))>>24u;}
var<workgroup>partialSums_0:array<f32,256>;
fn stored_0(a:vec3u,b:u32)->f32{var c=a.x;var d=weight_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(weight_0[h+i]));}}return f;}
fn stored_1(a:vec3u,b:u32)->f32{var c=a.x;var d=bias_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(bias_0[h+i]));}}return f;}
@compute@workgroup_size(32,8,1)fn MlpMatmul(@builtin(workgroup_id)a:vec3u,@builtin(local_invocation_id)b:vec3u,@builtin(local_invocation_index)c:u32){var d:bool;var e=b.x;var f=a.x*8u+b.y;var g=f<Constants_0.outputs_0;var h=e;var i=0f;for(;;){d=g&&(h<Constants_0.inputs_0);if(d){}else{break;}var j=stored_0(Constants_0.weight_layout_0,f*Constants_0.inputs_0+h);var k=i+j*x_0[h];h=h+32u;i=k;}partialSums_0[c]=i;workgroupBarrier();var l=16u;for(;l>0u;){if(e<l){partialSums_0[c]=partialSums_0[c]+partialSums_0[c+l];}workgroupBarrier();l=l/2u;}d=g&&(e==0u);if(d){var m=partialSums_0[c];var n=stored_1(Constants_0.bias_layout_0,f);var o=m+n;if(Constants_0.relu_0!=0u){i=max(o,0f);}else{i=o;}y_0[f]=i;}}`,
};

/** @type {import("../shader.js").Shader} */
export const MlpMatmulTransposed = {
  ...{"stage":"comp","entry":"MlpMatmulTransposed","buffers":[{"name":"weight","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"bias","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"x","binding":2,"read_only":true,"scalar":"float","stride":4},{"name":"y","binding":3,"read_only":false,"scalar":"float","stride":4}],"constants":[{"name":"weight_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"bias_layout","offset":16,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"inputs","offset":28,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"outputs","offset":32,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"relu","offset":36,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":4,"threads":[64,1,1]},
  code: `struct Constants{@align(16)weight_layout_0:vec3u,@align(16)bias_layout_0:vec3u,@align(4)inputs_0:u32,@align(16)outputs_0:u32,@align(4)relu_0:u32,};
@binding(4)@group(0)var<uniform>Constants_0:Constants;
@binding(0)@group(0)var<storage,read>weight_0:array<u32>;
@binding(2)@group(0)var<storage,read>x_0:array<f32>;
@binding(3)@group(0)var<storage,read_write>y_0:array<f32>;
@binding(1)@group(0)var<storage,read>bias_0:array<u32>;
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn byteAt_0(a:u32,b:u32)->i32{return i32(a<<(24u-8u*b))>>24u;}
fn stored_0(a:vec3u,b:u32)->f32{var c=a.x;var d=weight_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(weight_0[h+i]));}}return f;}
fn stored_1(a:vec3u,b:u32)->f32{var c=a.x;var d=bias_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(bias_0[h+i]));}}return f;}
@compute@workgroup_size(64,1,1)fn MlpMatmulTransposed(@builtin(global_invocation_id)a:vec3u){var b=a.x;if(b>=Constants_0.outputs_0){return;}var c=0u;var d=0f;for(;c<Constants_0.inputs_0;){var e=stored_0(Constants_0.weight_layout_0,c*Constants_0.outputs_0+b);var f=d+e*x_0[c];c=c+1u;d=f;}var g=stored_1(Constants_0.bias_layout_0,b);y_0[b]=d+g;}`,
};
